"""Turkish: what the server's own pages say, by what they say in English."""

from collections.abc import Mapping
from types import MappingProxyType
from typing import Final

TEXTS: Final[Mapping[str, str]] = MappingProxyType(
    {
        # the way in
        "Agora · enter": "Agora · giriş",
        "Token or code": "Anahtar ya da kod",
        "Enter": "Gir",
        "Enter with what this server's operator gave you.": "Bu sunucunun görevlisinin size verdiğiyle girin.",
        "This token is not one of this server's: ask its operator for another.": (
            "Bu anahtar bu sunucunun değil: görevliden başka bir tane isteyin."
        ),
        "This token is of another version: ask the server's operator for another.": (
            "Bu anahtar başka bir sürümün: sunucunun görevlisinden başka bir tane isteyin."
        ),
        "This token has expired: ask the server's operator for another.": (
            "Bu anahtarın süresi doldu: sunucunun görevlisinden başka bir tane isteyin."
        ),
        "This code was used already or its time is over: ask for another, or enter with a token.": (
            "Bu kod kullanılmış ya da süresi dolmuş: başka bir tane isteyin ya da bir anahtarla girin."
        ),
        # in the place of a page that there is not
        "Not here": "Burada yok",
        "There is nothing at this address. The square is on the start page.": (
            "Bu adreste bir şey yok. Antik meydan başlangıç sayfasında."
        ),
        "Not for everyone": "Herkese açık değil",
        "This page is for those with a token of this server.": "Bu sayfa, bu sunucunun bir anahtarına sahip olanlar içindir.",
        "This page is for others than the token that you entered with.": (
            "Bu sayfa, girerken kullandığınız anahtara açık değil."
        ),
        "This server does not go by that name: use the address that it printed.": (
            "Bu sunucunun adı bu değil: ekrana yazdığı adresi kullanın."
        ),
        "Only this server's own pages may connect.": "Yalnızca bu sunucunun kendi sayfaları bağlanabilir.",
        "Too many at once": "Bir anda çok fazla",
        "Too many requests from your address: wait a little.": "Adresinizden çok fazla istek geldi: biraz bekleyin.",
        "Not just now": "Şu anda olmuyor",
        "That did not work: try again in a moment.": "Bu olmadı: birazdan yeniden deneyin.",
        "The operator's console is not running.": "Görevlinin konsolu çalışmıyor.",
        "To the square": "Meydana git",
        # the certificate of a server's own authority
        "Agora · certificate": "Agora · sertifika",
        "Let this device trust Agora": "Bu aygıt Agora'ya güvensin",
        "Open this page on the phone or tablet: scan the code, or go to": (
            "Bu sayfayı telefonda ya da tablette açın: kodu okutun ya da şu adrese gidin:"
        ),
        "Load the certificate": "Sertifikayı yükleyin",
        "iPhone, iPad: Settings, Profile Downloaded, Install; then General, About, Certificate Trust Settings: switch it on.": (
            "iPhone, iPad: Ayarlar, Profil İndirildi, Yükle; sonra Genel, Hakkında, Sertifika Güven Ayarları: açın."
        ),
        "Android: Settings, Security, Encryption & credentials, Install a certificate, CA certificate.": (
            "Android: Ayarlar, Güvenlik, Şifreleme ve kimlik bilgileri, Sertifika yükle, CA sertifikası."
        ),
        "Compare its SHA-256 fingerprint with what the server printed when it was started:": (
            "SHA-256 parmak izini, sunucunun başlarken ekrana yazdığıyla karşılaştırın:"
        ),
        "It can vouch for this server alone, and the key that could sign more is gone. Remove it when the visit is over.": (
            "Yalnızca bu sunucuya kefil olabilir; başkasını imzalayabilecek anahtar silindi. Gezi bitince kaldırın."
        ),
        # calibrating a camera
        "Agora: calibrating the camera": "Agora: kamera kalibrasyonu",
        "Calibrating the camera": "Kamera kalibrasyonu",
        "Waiting for the first picture …": "İlk görüntü bekleniyor …",
        "What the camera sees, with the board's corners marked": "Kameranın gördüğü; panonun köşeleri işaretli",
        "Covered": "Kapsanan",
        "Different views": "Farklı görünüm",
        "Slanted": "Eğik",
        "{count} of {wanted}": "{count} / {wanted}",
        "{percent} %": "% {percent}",
        "Orange dots are corners that were found; green fills where enough were seen. In the terminal ctrl-C ends it.": (
            "Turuncu noktalar bulunan köşelerdir; yeterince köşe görülen yerler yeşille dolar. "
            "Terminalde ctrl-C bitirir."
        ),
        "The program has ended; its last words are in the terminal.": "Program bitti; son sözleri terminalde.",
        "Done: the lens is known, and its figures are in the terminal.": "Tamam: mercek biliniyor; sayıları terminalde.",
        "Show the board to the camera: nothing of it is seen yet.": "Panoyu kameraya gösterin: henüz hiç görünmüyor.",
        "Bring the board to the {side} of the picture; a part of it is enough.": (
            "Panoyu görüntünün şu yanına getirin: {side}. Bir parçası görünse yeter."
        ),
        "top left": "sol üst",
        "top": "üst",
        "top right": "sağ üst",
        "left": "sol",
        "middle": "orta",
        "right": "sağ",
        "bottom left": "sol alt",
        "bottom": "alt",
        "bottom right": "sağ alt",
        "Slant the board by 30 degrees to each side, and up and down.": (
            "Panoyu 30 derece kadar her iki yana, yukarı ve aşağı eğin."
        ),
        "Go on, near and far, and hold still now and then.": "Yakından ve uzaktan devam edin; arada bir kıpırdamadan durun.",
        "That is enough.": "Bu kadarı yeter.",
    }
)
